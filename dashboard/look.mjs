import { chromium } from 'playwright-core';
const b=await chromium.launch({executablePath:'/usr/bin/chromium',args:['--no-sandbox']});
const p=await b.newPage({viewport:{width:1440,height:1500}});
p.on('console',m=>console.log('console',m.type(),m.text())); p.on('pageerror',e=>console.log('pageerror',e.message));
p.on('requestfailed',r=>console.log('failed',r.url(),r.failure()?.errorText));
const U='http://127.0.0.1:18182/dashboard/';
const job=process.argv[2];
await p.goto(U+'#start=8142688.55,-276614.34&goal=8142528.03,-276775.79');
if(process.argv[2]==='plan'){
await p.waitForTimeout(1500);
await p.click('[data-do=plan]'); await p.waitForTimeout(1500); await p.screenshot({path:'/tmp/s2.png'});
await p.waitForSelector('[data-verdict]',{timeout:60000}); await p.waitForTimeout(1000);
console.log(p.url().match(/job=(\w+)/)?.[1]);
await p.screenshot({path:'/tmp/s3.png'});
await p.mouse.move(830,860); await p.mouse.move(832,860); await p.waitForTimeout(400); await p.screenshot({path:'/tmp/s4.png',clip:{x:340,y:40,width:1100,height:1450}});
}
await p.click('#tab-jobs'); await p.waitForTimeout(800); await p.screenshot({path:'/tmp/s5.png',clip:{x:0,y:0,width:800,height:500}});
await p.click('#tab-drives'); await p.waitForTimeout(800); await p.screenshot({path:'/tmp/s6.png',clip:{x:0,y:0,width:800,height:700}});
await p.click('#tab-check'); await p.fill('textarea','8142579.7,-276648.7\n8142578,-276680'); await p.click('[data-do=check]'); await p.waitForTimeout(300);
await p.waitForFunction(()=>/check/.test(document.querySelector('dl')?.textContent??''),null,{timeout:60000}); await p.waitForTimeout(1500);
await p.click('text=Dark'); await p.waitForTimeout(600);
await p.screenshot({path:'/tmp/s7.png'});
await b.close();
